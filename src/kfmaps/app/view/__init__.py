"""Web pages: the view of a result and the landmark picker."""
