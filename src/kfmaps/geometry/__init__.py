"""What a surface is and what lives on it: vertices, distances, functions, samples."""
