#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/errors/error_link.h"

/// The error chains that are made of links (inertial/errors): they differ in which links they take.
namespace canyon::inertial {
namespace {

class LinkChain final : public ErrorChain {
 public:
  LinkChain(std::vector<std::unique_ptr<ErrorLink>> links, const ImuNoise& noise, double dt_s)
      : links_(std::move(links)), noise_(noise), dt_s_(dt_s) {}

  void corrupt(std::int64_t k, ImuSample& sample) override { corrupt_batch(k, {&sample, 1}); }

  void corrupt_batch(std::int64_t first, std::span<ImuSample> samples) override {
    CANYON_CHECK(first >= 0, "sample number = ", first);
    while (!samples.empty()) {
      block_.first = first;
      block_.count = std::min(samples.size(), kImuBlock - block_.offset());
      block_.samples = samples.first(block_.count);
      take_in();
      for (const auto& link : links_) link->apply(block_);
      give_out();
      first += static_cast<std::int64_t>(block_.count);
      samples = samples.subspan(block_.count);
    }
  }

  std::int64_t memory() const override {
    std::int64_t sum = 0;
    for (const auto& link : links_) sum += link->memory();
    return sum;
  }
  const ImuNoise& noise() const override { return noise_; }

 private:
  void take_in() {
    for (std::size_t i = 0; i < block_.count; ++i) {
      const ImuSample& s = block_.samples[i];
      CANYON_CHECK(std::abs(s.dt_s - dt_s_) <= 1e-3 * dt_s_, "the sample covers ", s.dt_s,
                   " s, the chain was made for ", dt_s_, " s");
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        block_.triads[0].truth[axis][i] = block_.triads[0].output[axis][i] = s.dtheta_U[a];
        block_.triads[1].truth[axis][i] = block_.triads[1].output[axis][i] = s.dv_U[a];
      }
    }
  }
  void give_out() {
    for (std::size_t i = 0; i < block_.count; ++i) {
      ImuSample& s = block_.samples[i];
      const auto& gyro = block_.triads[0].output;
      const auto& accel = block_.triads[1].output;
      s.dtheta_U = {gyro[0][i], gyro[1][i], gyro[2][i]};
      s.dv_U = {accel[0][i], accel[1][i], accel[2][i]};
    }
  }

  std::vector<std::unique_ptr<ErrorLink>> links_;
  ImuNoise noise_;
  double dt_s_;
  ImuBlock block_;
};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// `only`: the links the chain may have; empty = all.
std::unique_ptr<ErrorChain> link_chain(const ChainSetup& setup, const UnitFigures& figures, const ImuNoise& noise,
                                       const std::vector<std::string>& only) {
  const LinkSetup link_setup{.figures = figures,
                             .environment = setup.environment,
                             .seed = setup.seed,
                             .dt_s = 1.0 / setup.rate_hz,
                             .noise_seed = setup.noise_seed};
  std::vector<std::unique_ptr<ErrorLink>> links;
  for (const auto& row : error_links()) {
    if (contains(setup.leave_out, row.name) || (!only.empty() && !contains(only, row.name))) continue;
    if (auto link = row.make(link_setup)) links.push_back(std::move(link));
  }
  return std::make_unique<LinkChain>(std::move(links), noise, link_setup.dt_s);
}

double rss(double a, double b) {
  return std::sqrt(a * a + b * b);
}

/// What the further links of the full chain leave at rest under 1 g, as a turn-on bias: temperature, specific force in
/// the gyroscope, vibration.
double further_bias(const TriadFigures& f, const UnitFigures& unit, const Environment& e) {
  double above_k = 0.0;
  for (const double t_c : e.temperatures_c) above_k = std::max(above_k, std::abs(t_c - unit.reference_temperature_c));
  // Each axis rectifies its own vibration; the filter is told one figure for the three.
  const double vibration = f.vibration_rectification * e.vibration_rms_m_s2.cwiseAbs2().maxCoeff();
  return rss(rss(f.bias_temperature * above_k, f.g_sensitivity * kStandardGravity), vibration);
}

/// The paper's low fidelity: "perfect calibration, with no bias or scale effects and a correlation time of 1500
/// seconds".
TriadNoise white_part(const TriadNoise& noise) {
  TriadNoise white;
  white.white_per_sqrt_hz = noise.white_per_sqrt_hz;
  white.in_run_bias_tau_s = 1500.0;
  return white;
}

}  // namespace

Result<std::unique_ptr<ErrorChain>> make_datasheet_chain(const ChainSetup& setup) {
  return link_chain(setup, setup.entry.figures(), setup.entry.noise(),
                    {"scale_factor", "misalignment", "turn_on_bias", "in_run_bias", "white_noise"});
}

Result<std::unique_ptr<ErrorChain>> make_white_only_chain(const ChainSetup& setup) {
  const ImuNoise full = setup.entry.noise();
  const ImuNoise white{.gyro = white_part(full.gyro), .accel = white_part(full.accel)};
  return link_chain(setup, setup.entry.figures(), white, {"white_noise"});
}

Result<std::unique_ptr<ErrorChain>> make_full_chain(const ChainSetup& setup) {
  UnitFigures figures = setup.entry.figures();
  ImuNoise noise = setup.entry.noise();
  noise.gyro.turn_on_bias_sigma =
      rss(noise.gyro.turn_on_bias_sigma, further_bias(figures.gyro, figures, setup.environment));
  noise.accel.turn_on_bias_sigma =
      rss(noise.accel.turn_on_bias_sigma, further_bias(figures.accel, figures, setup.environment));
  noise.gyro.misalignment_sigma_rad = rss(noise.gyro.misalignment_sigma_rad, figures.gyro.package_rad);
  noise.accel.misalignment_sigma_rad = rss(noise.accel.misalignment_sigma_rad, figures.accel.package_rad);
  if (setup.entry.in_run_bias_is_instability) {
    for (TriadFigures* f : {&figures.gyro, &figures.accel}) {
      if (f->bias_instability > 0.0) f->in_run_bias = 0.0;
    }
  }
  return link_chain(setup, figures, noise, {});
}

}  // namespace canyon::inertial
