"""`python -m selfconf` is `selfconf`."""

from selfconf.cli.main import main

if __name__ == "__main__":
    raise SystemExit(main())
