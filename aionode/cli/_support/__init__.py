"""The parts that nouns share: declaring commands, running verbs, looking up names, printing."""
