// Whether exposures differ on purpose, or because the camera met the light by itself.
#ifndef ORL_PREPROCESS_BRACKETING_H
#define ORL_PREPROCESS_BRACKETING_H

#include <stdbool.h>
#include <stddef.h>

// ev: log2 of the exposures; light: log2 of the light in each picture as it is (metered.h). Automatic
// exposure makes all pictures about equally bright; where exposures differ on purpose, those of more
// exposure are brighter. True where brightness grows by less than a quarter of a stop with each stop of
// exposure: by 0.1 at most in photographs of three places, by 0.3 to 1 in made-up brackets.
bool orl_exposures_are_metered(const double *ev, const double *light, size_t count);

#endif
