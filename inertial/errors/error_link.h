#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "canyon/core/model_table.h"
#include "canyon/inertial/environment.h"
#include "canyon/inertial/errors/error_figures.h"
#include "canyon/inertial/errors/imu_block.h"

namespace canyon::inertial {

/// One link of the error chain. Links that belong to the sensing elements add to the output an error computed from the
/// true input, so that they add up and none depends on another; links of the output stage transform the output so far.
///
/// The random part of an error depends only on (seed, stream, axis, sample), and bias, gain and noise links on that and
/// the input of the sample alone: any sample can be asked for at any time, alone or in a batch, with the same bits.
class ErrorLink {
 public:
  virtual ~ErrorLink() = default;
  virtual void apply(ImuBlock& block) = 0;
  /// How many samples before it a sample depends on through the input; only latency and losses have memory. Where the
  /// samples asked for do not follow the last ones, such a link starts over: nothing earlier is known, and the present
  /// input stands for it.
  virtual std::int64_t memory() const { return 0; }
};

/// What a link is made from.
struct LinkSetup {
  UnitFigures figures;
  Environment environment;
  std::uint64_t seed = 0;
  double dt_s = 0.01;                         ///< nominal interval of the samples
  std::optional<std::uint64_t> noise_seed{};  ///< of the white noise; none: `seed`
};

/// Gives null where the unit has no such error.
using MakeErrorLink = std::unique_ptr<ErrorLink>(const LinkSetup& setup);
/// All links, in the order in which they act.
ModelTable<MakeErrorLink> error_links();

/// Makers of the rows, each in the file of its model.
std::unique_ptr<ErrorLink> make_latency(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_misalignment(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_package_misalignment(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_scale_factor(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_scale_asymmetry(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_nonlinearity(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_g_sensitivity(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_turn_on_bias(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_in_run_bias(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_flicker(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_rate_random_walk(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_ramp(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_temperature(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_vibration_rectification(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_white_noise(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_quantization_noise(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_cross_talk(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_dead_band(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_saturation(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_quantization(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_losses(const LinkSetup& setup);
std::unique_ptr<ErrorLink> make_clock(const LinkSetup& setup);

/// One triad's part of a setup.
struct TriadSetup {
  std::string name;  ///< prefix of the streams: imu.gyro or imu.accel
  TriadFigures figures;
  const LinkSetup& unit;
};

/// A link that does the same to both triads: `Law` has a constructor from TriadSetup, `static bool needed(const
/// TriadFigures&)` and `void apply(const ImuBlock&, TriadBlock&)`. Null where neither triad needs it.
template <class Law>
std::unique_ptr<ErrorLink> make_for_both_triads(const LinkSetup& setup) {
  class BothTriads final : public ErrorLink {
   public:
    void apply(ImuBlock& block) override {
      for (std::size_t i = 0; i < 2; ++i) {
        if (laws[i]) laws[i]->apply(block, block.triads[i]);
      }
    }
    std::array<std::unique_ptr<Law>, 2> laws;
  };
  auto link = std::make_unique<BothTriads>();
  const std::array<TriadSetup, 2> triads = {TriadSetup{"imu.gyro", setup.figures.gyro, setup},
                                            TriadSetup{"imu.accel", setup.figures.accel, setup}};
  for (std::size_t i = 0; i < 2; ++i) {
    if (Law::needed(triads[i].figures)) link->laws[i] = std::make_unique<Law>(triads[i]);
  }
  if (!link->laws[0] && !link->laws[1]) return nullptr;
  return link;
}

}  // namespace canyon::inertial
