"""Selection of designs for a target."""
