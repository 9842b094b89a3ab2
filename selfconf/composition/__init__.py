"""Act 3 of the paper, composition: from a task and an ecology to a configuration or an explained refusal."""

from selfconf.composition.composer import Composer, Strategy

__all__ = ["Composer", "Strategy"]
