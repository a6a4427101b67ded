"""Non-rigid registration: bend one surface onto another."""
