#pragma once

#include "canyon/core/result.h"
#include "canyon/core/time.h"
#include "canyon/gnss/sensor/satellite_source.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/reproduce/reproduction.h"

/// What is reproduced, a file for each of the paper's sections. A part is a function here and a line of the verb.
namespace canyon::study {

/// What the GNSS parts see: where and when the paper's authors measured, Vicksburg on 17 November 2010, 13:00.
struct PaperSky {
  gnss::SatelliteSourceConfig satellites;
  GpsTime start = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
};

/// Table 1 and figure 1: the mean offset of the position by each range error alone, at points along a circle.
Result<PaperPart> range_error_part(const PaperSky& sky);

/// Table 2 and figures 4 to 6: how positions scatter that a receiver gives at two places and along two tracks, by
/// `draws` starts half an hour apart.
Result<PaperPart> receiver_scatter_part(const PaperSky& sky, std::int64_t draws);

/// Figures 2, 3 and 7: resting units and where they are by plain integration, by seeds 1 to `draws`.
Result<std::vector<PaperPart>> inertial_parts(std::int64_t draws);

/// Figures 8 to 10, of each `seeds` missions from the file's own seed on: outcomes, and what the models say on the
/// mission's route driven on truth; then what they do to the output of algorithms, which the paper names as future
/// work. `scratch` takes what runs must put aside.
Result<std::vector<PaperPart>> mission_parts(const mission::MissionFile& file, std::int64_t seeds,
                                             const std::string& scratch, bool show_progress);

}  // namespace canyon::study
