"""The library behind `import selfconf`, a module for each question; the command line is its first user.

What can be asked of any ecology, in files or alive, stands here; three rooms hold the rest: `living`, what is asked of
a living ecology; `tasks`, what runs there; `sites`, the programs that serve it. `selfconf/__init__.py` is the door for
other programs: it loads these modules when one of their names is first used.
"""
