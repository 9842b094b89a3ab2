"""The living ecology, as the library asks it over Zenoh: what lives, what is deployed, what is issued and logged."""
