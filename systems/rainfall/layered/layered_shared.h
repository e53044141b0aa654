// Numbers that C++ and GLSL of the layered composite share.
#ifndef PETRICHOR_LAYERED_SHARED_H
#define PETRICHOR_LAYERED_SHARED_H
#define LAYERED_SHELLS 4
#define LAYERED_PARTS 3   // of a shell, by distance: each has light of its own
#define LAYERED_LEVELS 5
#define LAYERED_SHAPES 8  // drops in the normal map
#endif
