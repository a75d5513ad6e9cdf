"""What a deployment means: processes on hosts, with their commands, configurations, connections and order."""
