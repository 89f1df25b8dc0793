#include "canyon/study/tolerance/tolerance.h"

namespace canyon::study {
namespace {

constexpr const char* kOrigin = "the disturbance";

void set(mission::MissionFile& file, const char* key, double size) {
  file.set_option(key, ConfigNode::of(size), kOrigin);
}

void white_fixes(mission::MissionFile& file, double size) {
  file.set_option("gnss.model", ConfigNode::of(std::string("truth_plus_white")), kOrigin);
  set(file, "gnss.white_sigma_m", size);
  set(file, "gnss.white_sigma_up_m", size);
}

void steps(mission::MissionFile& file, double size) {
  set(file, "run.told_step_m", size);
}

void drift(mission::MissionFile& file, double size) {
  set(file, "run.told_drift_m_s", size);
}

void heading(mission::MissionFile& file, double size) {
  set(file, "run.told_heading_deg", size);
}

void height(mission::MissionFile& file, double size) {
  set(file, "run.estimate_up_offset_m", size);
}

constexpr ModelRow<Disturb> kDisturbances[] = {
    {"white_fix_m", white_fixes, "fixes with white noise of this 1-sigma per axis, which they state"},
    {"step_m", steps, "the place that the autonomy is told jumps to so far off, every 20 s another way"},
    {"drift_m_s", drift, "the place that the autonomy is told moves off at this speed"},
    {"heading_deg", heading, "the heading that the autonomy is told is off by this"},
    {"height_m", height, "the height that all are told is off by this"},
};

}  // namespace

ModelTable<Disturb> disturbances() {
  return kDisturbances;
}

std::vector<double> usual_sizes(const std::string& disturbance) {
  if (disturbance == "step_m") return {1.0, 2.0, 3.0, 5.0, 10.0, 30.0};
  if (disturbance == "drift_m_s") return {0.01, 0.03, 0.1, 0.3, 1.0};
  if (disturbance == "heading_deg") return {0.1, 0.3, 1.0, 2.0, 5.0};
  return {0.1, 0.3, 1.0, 3.0, 10.0};
}

}  // namespace canyon::study
