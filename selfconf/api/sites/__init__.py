"""Sites and bridges as programs, and what they need to become members of their ecology."""
