//! What the paper's sections stand on: segments, surfaces, shared positions.
