"""Settings on the command line: presets, TOML files, flags and ``--set``, made into a ``Config``."""
