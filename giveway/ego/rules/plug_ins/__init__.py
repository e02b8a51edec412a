"""Rules of other packages: found and made, checked among giveway's own, tried by a kit."""
