#include "canyon/core/process/version.h"

namespace canyon {

const char* const kVersion =
#include "embedded/version.inc"
    ;

}  // namespace canyon
