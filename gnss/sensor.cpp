#include "gnss/sensor.h"

#include "gnss/model_table.h"
#include "gnss/sensor_models.h"

namespace canyon::gnss {
namespace {

using MakeSensor = Result<std::unique_ptr<GnssSensor>>(const GnssConfig&, std::uint64_t, GpsTime, GpsTime,
                                                       const scene::Scene&);

constexpr ModelRow<MakeSensor> kSensors[] = {
    {"truth_plus_isotropic", make_isotropic_sensor,
     "truth plus a random direction times U(min, max), independent per fix"},
};

}  // namespace

Result<std::unique_ptr<GnssSensor>> make_gnss_sensor(const GnssConfig& config, std::uint64_t seed, GpsTime start,
                                                     GpsTime end, const scene::Scene& scene) {
  const auto* row = find_model<MakeSensor>(kSensors, config.model);
  if (row == nullptr)
    return Error{"", 0, "gnss.model", "\"" + config.model + "\" is not a model", "truth_plus_isotropic"};
  return row->make(config, seed, start, end, scene);
}

}  // namespace canyon::gnss
