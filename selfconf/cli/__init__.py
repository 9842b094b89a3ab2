"""The command line: arguments in, one call into the library, words out. Each command is a module."""
