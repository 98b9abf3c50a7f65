"""What the nouns share: declaring commands, running verbs, looking up names, printing."""
