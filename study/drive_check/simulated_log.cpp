#include "canyon/study/drive_check/simulated_log.h"

#include "canyon/core/math/median.h"
#include "canyon/core/process/progress.h"
#include "canyon/gnss/sensor/simulation/drive_files.h"
#include "canyon/scene/scene_at.h"

namespace canyon::study {
namespace {

double median_interval_s(const std::vector<GpsTime>& epochs) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < epochs.size(); ++i) intervals_s.push_back(epochs[i] - epochs[i - 1]);
  return intervals_s.empty() ? 1.0 : median(intervals_s);
}

}  // namespace

Result<SimulatedLog> simulated_log(const DriveCheckInputs& inputs, const PlacePath& truth,
                                   const std::vector<GpsTime>& epochs, std::vector<std::string>& warnings) {
  const double interval_s = median_interval_s(epochs);
  gnss::GnssConfig receiver = inputs.receiver;
  receiver.rate_hz = 1.0 / interval_s;
  SimulatedLog out;
  CANYON_TRY(out.source, make_satellite_source(receiver.satellites, epochs.front(), epochs.back()));
  CANYON_TRY(const auto sensor, make_gnss_sensor(receiver, inputs.seed, epochs.front(), epochs.back(), inputs.scene));
  if (!sensor->has_satellites())
    return Error{"", 0, "gnss.model", "\"" + receiver.model.name + "\" observes no satellites", "\"pseudorange\""};
  const LocalFrame& frame = inputs.scene.frame();
  const scene::SceneAt scene(inputs.scene);
  gnss::DriveFiles files(inputs.scene.parts().undulation_m);
  std::int64_t index = 0;
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    throw_if_cancelled();
    if (i > 0) index += epochs[i] - epochs[i - 1] <= 1.6 * interval_s ? 1 : 2;
    const auto state = truth.at(epochs[i]);
    files.add(sensor->measure(index, epochs[i], frame.to_W(state->p_E), frame.R_EW().transpose() * state->v_E, scene));
  }
  for (const std::string& warning : sensor->warnings()) warnings.push_back(warning);
  const gnss::Drive drive{.path = truth,
                          .path_name = inputs.reference_name,
                          .start = epochs.front(),
                          .duration_s = epochs.back() - epochs.front(),
                          .rate_hz = receiver.rate_hz};
  const std::string name = "simulated observations";
  CANYON_TRY(const std::string text, files.rinex_observations(drive, out.source, name));
  CANYON_TRY(out.observations, gnss::parse_observation_file(text, name));
  return out;
}

}  // namespace canyon::study
