"""Do the tests notice? Small faults go into the code, one by one, and each should fail a test."""
