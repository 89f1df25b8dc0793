#include "canyon/core/earth/local_frame.h"

namespace canyon {

LocalFrame::LocalFrame(const Geodetic& origin)
    : origin_(origin), R_EW_(rotation_E_from_enu(origin)), origin_E_(ecef_from_geodetic(origin)) {}

}  // namespace canyon
