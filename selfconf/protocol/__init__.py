"""What travels between sites, components and configurators: keys, messages, their encoding, and a component's life."""
