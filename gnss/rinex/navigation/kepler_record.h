#pragma once

#include <string_view>

#include "canyon/gnss/rinex/record_fields.h"
#include "canyon/gnss/satellites/ephemerides/kepler_ephemeris.h"

namespace canyon::gnss {

/// The message a RINEX 4 record names ("LNAV", "CNV1", ...) for a system; nullopt if that pair is none that is read
/// here.
std::optional<NavigationMessage> kepler_message(GnssSystem system, std::string_view name);
/// What a record of RINEX 2 or 3, which name no message, is: LNAV, D1 or D2 by satellite (C01-C05 and C59-C63 are
/// geostationary), Galileo by its data sources: F/NAV if its clock or its data are of E5a, else I/NAV.
NavigationMessage kepler_message_of_old_record(const RecordLines& record, SatelliteId sv);

/// One record of GPS, QZSS, Galileo or BeiDou. The Error's line is the faulty one's, its `what` starts with the
/// satellite.
Result<KeplerEphemeris> parse_kepler_record(const RecordLines& record, SatelliteId sv, NavigationMessage message);

}  // namespace canyon::gnss
