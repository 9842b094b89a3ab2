"""What selfconf claims about speed, measured side by side with its peers; each module is a command of its own."""
