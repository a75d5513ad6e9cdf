"""The network that is derived from a deployment: processes, with commands, configurations, connections and order."""
