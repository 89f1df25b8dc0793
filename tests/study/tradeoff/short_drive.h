#pragma once

#include <memory>
#include <string>

#include "canyon/study/compare.h"
#include "canyon/study/tradeoff/recorded/recorded_drive.h"

namespace canyon::study::testing {

/// 120 m along a street of the built-in city.
const mission::MissionFile& short_drive_file();
/// The same, prepared once for all tests, with its own route as the tape.
const Comparison& short_drive();

/// What canyon's own receiver, with the path model "specular2", the Klobuchar ionosphere and the standard troposphere,
/// without noise, "recorded" on that drive: RINEX, truth and description, written to a folder of their own and read
/// back. Once for all tests.
const RecordedDrive& made_recording();
/// Path of its description.
std::string made_recording_path();

}  // namespace canyon::study::testing
