"""What one shape can tell about each of its points."""
