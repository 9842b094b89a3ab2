"""The reactive configurator as a pure machine, with no network, clock or thread in it.

`machine.step(state, event)` gives the next state (`state`) and what is to be done (`effects`) about what the
configurator has heard (`events`).
"""
