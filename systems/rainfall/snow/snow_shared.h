// What the snow's C++ and GLSL share besides rain_shared.h.
#ifndef PETRICHOR_SNOW_SHARED_H
#define PETRICHOR_SNOW_SHARED_H

#define SNOW_DISC_CAPACITY 131072  // flakes wider than a pixel; what is over is drawn where it is found
#define SNOW_DISC_LANES 8          // invocations that share one
#define SNOW_GROUP 64
#define SNOW_LEAST_DISC 0.75       // radius in pixels from which a flake is drawn as a disc
#define SNOW_FILTER 0.6            // pixels that the picture's own sharpness adds to a disc's radius
#define SNOW_PIECES 16             // of a flake's path in an exposure, at most

#endif
