"""What the text of the source claims, checked with both strain energies; ``claim`` says how, ``table`` lists them all."""
