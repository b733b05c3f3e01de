"""What files of plots end in; apart from all that draws, which takes half a second to import."""

SUFFIXES = (".png", ".svg", ".pdf")
