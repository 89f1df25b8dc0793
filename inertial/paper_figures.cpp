#include "canyon/inertial/paper_figures.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"

namespace canyon::inertial {
namespace {

constexpr double kRate_hz = 125.0;
constexpr std::int64_t kStepsPerLook = 4096;  // at whether the user wants to stop

CatalogueEntry built_in(const char* name) {
  auto entry = load_catalogue_entry(name);
  CANYON_CHECK(entry.ok(), "the catalogue lacks ", name);
  return *std::move(entry);
}

CatalogueEntry high_grade() {
  return built_in("high_grade_mems");
}

CatalogueEntry hobby() {
  return built_in("phidget_3_3_3");
}

/// Section 3, before the field test: quality factor 0.15, 10 s, 0.30 deg/s and 0.15 m/s^2; the offsets are the field's.
CatalogueEntry hobby_in_the_text() {
  CatalogueEntry e = hobby();
  e.paper.gyro.quality_factor = e.paper.accel.quality_factor = 0.15;
  e.paper.gyro.white_process = 0.30;
  e.paper.accel.white_process = 0.15;
  return e;
}

constexpr PaperFigure kFigures[] = {
    {"figures_2_and_3", "high-grade unit, 20 minutes, about 3 deg/h", 1200.0, high_grade},
    {"figure_7", "hobby unit: Q 0.2, 10 s, 0.15 deg/s, 0.12 m/s^2", 600.0, hobby},
    {"figure_7_text_parameters", "hobby unit of the text: Q 0.15, 10 s, 0.30 deg/s, 0.15 m/s^2", 600.0,
     hobby_in_the_text},
};

}  // namespace

std::span<const PaperFigure> paper_figures() {
  return kFigures;
}

Result<PaperDrift> paper_drift(const PaperFigure& figure, const std::string& chain_name, std::uint64_t seed) {
  CANYON_TRY(const auto chain,
             make_error_chain(chain_name, {.entry = figure.entry(), .seed = seed, .rate_hz = kRate_hz}));
  PaperDrift out;
  Eigen::Vector3d angle = Eigen::Vector3d::Zero(), speed = angle, position = angle;
  for (std::int64_t k = 0; k < std::llround(figure.seconds * kRate_hz); ++k) {
    if (k % kStepsPerLook == 0) throw_if_cancelled();
    ImuSample s;
    s.dt_s = 1.0 / kRate_hz;
    chain->corrupt(k, s);
    angle += s.dtheta_U;
    position += (speed + 0.5 * s.dv_U) * s.dt_s;
    speed += s.dv_U;
    out.t_s.push_back(static_cast<double>(k + 1) / kRate_hz);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      out.rate_deg_s[axis].push_back(s.dtheta_U[i] / s.dt_s / kDegree);
      out.angle_deg[axis].push_back(angle[i] / kDegree);
      out.position_m[axis].push_back(position[i]);
    }
  }
  return out;
}

}  // namespace canyon::inertial
