#include <cmath>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/errors/markov_process.h"
#include "canyon/inertial/paper_formulas.h"

/// The error chain of Durst & Goodin 2012, section 2.2, twice: as printed, and corrected. Both take the catalogue's
/// [paper] table.
namespace canyon::inertial {
namespace {

/// One triad's parameters in SI, shared by both chains.
struct Triad {
  std::string name;        // prefix of the streams
  double thermal_n;        // N of IEEE Std 952, per sqrt(Hz)
  double thermal_printed;  // what the printed formula gives, whatever its unit
  double quant_printed;
  double quantization;   // rad or m/s
  double white_process;  // rad/s or m/s^2
  double zero_offset;    // rad/s or m/s^2
  double scale_sigma;
  double tau_s;
};

Triad gyro_triad(const CatalogueEntry& e) {
  const PaperTriad& p = e.paper.gyro;
  const double temperature_k = e.paper.temperature_k;
  const double omega_0 = 2.0 * kPi * p.resonance_hz;
  const double stiffness = p.mass_kg * omega_0 * omega_0;
  const double resistance = p.mass_kg * omega_0 / p.quality_factor;
  return {
      .name = "imu.gyro",
      .thermal_n = gyro_thermal_density(temperature_k, omega_0, p.mass_kg, p.quality_factor, p.drive_amplitude_m),
      .thermal_printed =
          gyro_thermal_as_printed_m(p.quality_factor, stiffness, temperature_k, resistance, p.bandwidth_hz),
      .quant_printed = quantization_as_printed(p.quality_factor, e.paper.run_time_hr),
      .quantization = p.quantization * kDegree,
      .white_process = p.white_process * kDegree,
      .zero_offset = p.zero_offset * kDegree,
      .scale_sigma = e.gyro.scale_ppm.value * 1e-6,
      .tau_s = e.paper.correlation_time_s,
  };
}

Triad accel_triad(const CatalogueEntry& e) {
  const PaperTriad& p = e.paper.accel;
  const double omega_0 = 2.0 * kPi * p.resonance_hz;
  const double density = accel_thermal_density(e.paper.temperature_k, omega_0, p.mass_kg, p.quality_factor);
  return {
      .name = "imu.accel",
      .thermal_n = density / std::sqrt(2.0),
      .thermal_printed = density,
      .quant_printed = quantization_as_printed(p.quality_factor, e.paper.run_time_hr),
      .quantization = p.quantization,
      .white_process = p.white_process,
      .zero_offset = p.zero_offset,
      .scale_sigma = e.accel.scale_ppm.value * 1e-6,
      .tau_s = e.paper.correlation_time_s,
  };
}

/// As printed: every sample gets a draw of N(sigma_T, sigma_T), one of N(sigma_quant, sigma_quant), and sigma(t), where
///   sigma(t) = N(sigma(t-1), w) / tau + N(sigma_0, w),   sigma(0) = sigma_0.
/// The text asks for normal distributions "with means of" these quantities and gives no spread: sigma_T and sigma_quant
/// are taken as their own spreads, and the "white noise process coefficient" w as the recursion's.
class PrintedTriad {
 public:
  PrintedTriad(const Triad& p, std::uint64_t seed)
      : p_(p),
        thermal_(seed, p.name + ".thermal"),
        quantization_(seed, p.name + ".quantization"),
        recursion_(seed, p.name + ".recursion") {}

  void corrupt(std::int64_t k, double dt_s, Eigen::Vector3d& increment) {
    const Eigen::Vector3d one = Eigen::Vector3d::Ones();
    const auto i = static_cast<std::uint64_t>(k);
    const Eigen::Vector3d thermal = p_.thermal_printed * (one + thermal_.normal3(i));
    const Eigen::Vector3d quantization = p_.quant_printed * (one + quantization_.normal3(i));
    increment += (thermal + quantization + recursion_at(k)) * dt_s;
  }

  /// Means are what a filter sees as bias; the spreads, nearly independent between samples, as white noise at this
  /// rate.
  TriadNoise noise(double dt_s) const {
    const double memory = 1.0 / p_.tau_s;
    const double recursion = p_.white_process * std::sqrt(1.0 + memory * memory) / (1.0 - memory);
    const double variance =
        p_.thermal_printed * p_.thermal_printed + p_.quant_printed * p_.quant_printed + recursion * recursion;
    TriadNoise n;
    n.white_per_sqrt_hz = std::sqrt(variance * dt_s);
    n.turn_on_bias_sigma = std::abs(p_.zero_offset) / (1.0 - memory) + p_.thermal_printed + p_.quant_printed;
    n.in_run_bias_tau_s = p_.tau_s;
    return n;
  }

 private:
  const Eigen::Vector3d& recursion_at(std::int64_t k) {
    if (k < k_ || k_ < 0) {
      k_ = 0;
      sigma_t_.setConstant(p_.zero_offset);
    }
    while (k_ < k) {
      ++k_;
      const auto i = static_cast<std::uint64_t>(k_);
      const Eigen::Vector3d spread_of_previous = p_.white_process * recursion_.normal3(i, 0);
      const Eigen::Vector3d spread_of_offset = p_.white_process * recursion_.normal3(i, 1);
      for (int axis = 0; axis < 3; ++axis) {
        sigma_t_[axis] = recursion_as_printed(sigma_t_[axis] + spread_of_previous[axis], p_.tau_s,
                                              p_.zero_offset + spread_of_offset[axis]);
      }
    }
    return sigma_t_;
  }

  Triad p_;
  RandomStream thermal_, quantization_, recursion_;
  std::int64_t k_ = -1;
  Eigen::Vector3d sigma_t_ = Eigen::Vector3d::Zero();
};

/// Corrected: thermal noise as a density, quantization as the difference of successive white errors, a Gauss-Markov
/// process of stationary sigma w and correlation time tau, the zero offset, and a constant scale factor (the text names
/// one but gives no formula of its own).
class CorrectedTriad {
 public:
  CorrectedTriad(const Triad& p, std::uint64_t seed, double dt_s)
      : p_(p),
        thermal_(seed, p.name + ".thermal"),
        quantization_(seed, p.name + ".quantization"),
        recursion_(MarkovProcess::gauss_markov(seed, p.name + ".recursion", 0, p.white_process, p.tau_s, dt_s)),
        scale_(p.scale_sigma * RandomStream(seed, p.name + ".scale").normal3(0)) {}

  void corrupt(std::int64_t k, double dt_s, Eigen::Vector3d& increment) {
    const auto i = static_cast<std::uint64_t>(k);
    const Eigen::Vector3d bias = Eigen::Vector3d::Constant(p_.zero_offset) + recursion_.at(k);
    Eigen::Vector3d error = scale_.cwiseProduct(increment) + bias * dt_s;
    error += p_.thermal_n * std::sqrt(dt_s) * thermal_.normal3(i);
    if (p_.quantization > 0.0) error += p_.quantization * (quantization_.normal3(i + 1) - quantization_.normal3(i));
    increment += error;
  }

  TriadNoise noise() const {
    TriadNoise n;
    n.white_per_sqrt_hz = p_.thermal_n;
    n.turn_on_bias_sigma = std::abs(p_.zero_offset);
    n.in_run_bias_sigma = p_.white_process;
    n.in_run_bias_tau_s = p_.tau_s;
    n.scale_sigma = p_.scale_sigma;
    return n;
  }

 private:
  Triad p_;
  RandomStream thermal_, quantization_;
  MarkovProcess recursion_;
  Eigen::Vector3d scale_;
};

template <class TriadErrors>
class PaperChain final : public ErrorChain {
 public:
  PaperChain(TriadErrors gyro, TriadErrors accel, const ImuNoise& noise)
      : gyro_(std::move(gyro)), accel_(std::move(accel)), noise_(noise) {}
  void corrupt(std::int64_t k, ImuSample& sample) override {
    gyro_.corrupt(k, sample.dt_s, sample.dtheta_U);
    accel_.corrupt(k, sample.dt_s, sample.dv_U);
  }
  const ImuNoise& noise() const override { return noise_; }

 private:
  TriadErrors gyro_, accel_;
  ImuNoise noise_;
};

Status check_usable(const CatalogueEntry& e) {
  if (e.paper.given && e.paper.gyro.drive_amplitude_m > 0.0) return Ok{};
  return Error{.file = "",
               .key = "imu.errors",
               .what = "sensor \"" + e.name + "\" has no parameters for the paper's error chain",
               .expected = "a sensor with a [paper] table, such as \"high_grade_mems\" or \"phidget_3_3_3\""};
}

}  // namespace

Result<std::unique_ptr<ErrorChain>> make_paper_chain(const ChainSetup& setup) {
  const CatalogueEntry& entry = setup.entry;
  CANYON_TRY_STATUS(check_usable(entry));
  CorrectedTriad gyro(gyro_triad(entry), setup.seed, 1.0 / setup.rate_hz);
  CorrectedTriad accel(accel_triad(entry), setup.seed, 1.0 / setup.rate_hz);
  const ImuNoise noise{.gyro = gyro.noise(), .accel = accel.noise()};
  return std::unique_ptr<ErrorChain>(
      std::make_unique<PaperChain<CorrectedTriad>>(std::move(gyro), std::move(accel), noise));
}

Result<std::unique_ptr<ErrorChain>> make_paper_as_printed_chain(const ChainSetup& setup) {
  const CatalogueEntry& entry = setup.entry;
  CANYON_TRY_STATUS(check_usable(entry));
  if (entry.paper.correlation_time_s <= 1.0) {
    return Error{.file = "",
                 .key = "paper.correlation_time_s",
                 .what = join_values(entry.paper.correlation_time_s, " s makes the printed recursion diverge"),
                 .expected = "more than 1 s, or imu.errors = \"paper\""};
  }
  PrintedTriad gyro(gyro_triad(entry), setup.seed);
  PrintedTriad accel(accel_triad(entry), setup.seed);
  const ImuNoise noise{.gyro = gyro.noise(1.0 / setup.rate_hz), .accel = accel.noise(1.0 / setup.rate_hz)};
  return std::unique_ptr<ErrorChain>(
      std::make_unique<PaperChain<PrintedTriad>>(std::move(gyro), std::move(accel), noise));
}

}  // namespace canyon::inertial
