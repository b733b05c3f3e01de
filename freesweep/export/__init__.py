"""Tables for other programs: a slice of an atlas as CSV, NumPy or MATLAB arrays, C, JSON, MuJoCo or Simulink."""
