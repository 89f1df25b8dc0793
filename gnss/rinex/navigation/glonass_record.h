#pragma once

#include "canyon/gnss/rinex/record_fields.h"
#include "canyon/gnss/satellites/ephemerides/glonass_ephemeris.h"

namespace canyon::gnss {

/// One GLONASS record of RINEX 2 (.g file), 3 or 4 ("FDMA"): 4 lines, from 3.05 on 5 with the delay between G1 and G2.
/// Its epoch is UTC. The Error's line is the faulty one's, its `what` starts with the satellite.
Result<GlonassEphemeris> parse_glonass_record(const RecordLines& record, SatelliteId sv);

}  // namespace canyon::gnss
