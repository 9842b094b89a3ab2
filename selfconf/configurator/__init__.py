"""The reactive configurator as a pure machine: `step(state, event)` gives the next state and what is to be done."""
