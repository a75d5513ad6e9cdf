"""The engine for one machine: a small supervisor for each deployment, and its client."""
