"""The library behind `import selfconf`, a module for each question; the command line is its first user.

`selfconf/__init__.py` is the door for other programs: it loads these modules when one of their names is first used.
"""
