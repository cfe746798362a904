"""The web view: the state that the page shows, the server and its access checks, and driving from a browser."""
