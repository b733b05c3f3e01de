"""Side-by-side timing on the user's own machine: ``freesweep bench``. Nothing here is used by anything else."""
