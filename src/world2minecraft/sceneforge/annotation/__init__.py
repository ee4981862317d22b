"""The annotation page: a person sees a walk as pictures and writes what to tell the next one."""
