// From a deformed character back to its file.
#ifndef WRITE_HPP
#define WRITE_HPP

#include "load.hpp"

// Puts what `deformer` makes of a loaded character into its file. What is not reshaped stays as it is.
void deform(Loaded &loaded, const superdeform::Deformer &deformer);

#endif
