"""Pictures of many shots: opened rooms, turntables and streams of frames."""
