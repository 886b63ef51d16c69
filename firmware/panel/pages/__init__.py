"""The pages of the panel, one file each. A page draws itself and takes keys of its own."""
