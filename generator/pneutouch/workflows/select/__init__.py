"""Selection of designs that meet a target."""
