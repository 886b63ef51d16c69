"""The pages of the panel, one file each. A page draws itself and takes the keys that are its own."""
