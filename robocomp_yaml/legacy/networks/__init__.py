"""Legacy networks (managers and launchers) as deployments: commands, endpoints, and the components that they start."""
