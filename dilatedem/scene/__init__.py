"""A case put in place: what stands where at t = 0, and the arrays that the kernels work on."""
