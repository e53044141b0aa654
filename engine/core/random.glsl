// The numbers of engine/core/random.hpp on the GPU.
#ifndef PETRICHOR_RANDOM_GLSL
#define PETRICHOR_RANDOM_GLSL
#define RANDOM_FN
#include "engine/core/random.h"
#undef RANDOM_FN
#endif
