"""Why a study has no walk, in gait terms: laws in conflict, where they break, what would help."""
