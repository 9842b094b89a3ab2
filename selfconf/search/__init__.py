"""The search for a configuration, as constraint satisfaction; `docs/search.md` explains it.

* `problem`: the configuration problem, and the rules that every strategy shares. `budget`: steps that are left.
* `reduction`: the problem in small integers, by dominance and arc consistency.
* `engines`: depth-first search, matching, clause learning, weighted optimisation.
* `explain`: why there is no configuration. `recruiting`: components beside the players, because these need them.
* `strategies`: which configuration is the answer.
* `reconfigure`: the nearest configuration after a failure. `relaxations`: changes that make a refused task possible.
* `what_if`: what the loss of each component would bring.
"""
