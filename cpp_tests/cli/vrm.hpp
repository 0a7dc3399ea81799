// What a VRM holds in model units beside its meshes: spring bones, colliders, viewpoint.
#ifndef VRM_HPP
#define VRM_HPP

#include "load.hpp"

// Moves and scales it with the joints that it hangs from. `rest`: nodes after the deformation.
void move_points(Loaded &loaded, const superdeform::Deformer &deformer, const std::vector<Matrix> &rest);

#endif
