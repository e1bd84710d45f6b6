"""Studies: what they compute, draw and claim, and the report of what came out."""
