"""The network that is derived from a deployment: processes on hosts, with commands, configurations, connections, order."""
