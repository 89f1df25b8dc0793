#include "inertial/imu_model.h"

#include "core/check.h"
#include "inertial/catalogue.h"
#include "inertial/error_chain.h"
#include "inertial/true_increments.h"

namespace canyon::inertial {
namespace {

class StrapdownImu final : public ImuModel {
 public:
  StrapdownImu(const LocalFrame& frame, const Eigen::Vector3d& lever_arm_m, std::unique_ptr<ErrorChain> errors)
      : frame_(frame), lever_arm_m_(lever_arm_m), errors_(std::move(errors)) {}

  ImuSample sample(std::int64_t k, std::span<const KinematicState> nodes) override {
    CANYON_CHECK(k >= 0, "sample number = ", k);
    ImuSample sample = true_increments(nodes, frame_, lever_arm_m_);
    errors_->corrupt(k, sample);
    return sample;
  }
  const ImuNoise& noise() const override { return errors_->noise(); }

 private:
  LocalFrame frame_;
  Eigen::Vector3d lever_arm_m_;
  std::unique_ptr<ErrorChain> errors_;
};

}  // namespace

void visit(FieldVisitor& f, ImuConfig& c) {
  f.file("sensor", c.sensor, ".toml", "entry of the sensor catalogue, or a TOML file of your own sensor");
  f.choice("errors", c.errors, error_chain_names(), "error chain");
  f.number("rate_hz", c.rate_hz, {10, 5000}, "samples per second");
  f.vector3("lever_arm_m", c.lever_arm_m, {-100, 100}, "IMU in the body frame; axes parallel to the body's");
}

Result<std::unique_ptr<ImuModel>> make_imu(const ImuConfig& config, std::uint64_t seed, const LocalFrame& frame) {
  CANYON_TRY(const CatalogueEntry entry, load_catalogue_entry(config.sensor));
  for (const ErrorChainRow& row : error_chains()) {
    if (config.errors != row.name) continue;
    CANYON_TRY(std::unique_ptr<ErrorChain> errors, row.make(entry, seed, config.rate_hz));
    return std::unique_ptr<ImuModel>(std::make_unique<StrapdownImu>(frame, config.lever_arm_m, std::move(errors)));
  }
  const std::string nearest = nearest_word(config.errors, error_chain_names());
  return Error{
      .file = "",
      .key = "imu.errors",
      .what = "no error chain \"" + config.errors + "\"",
      .expected = nearest.empty() ? "datasheet, white_only, paper, paper_as_printed or none" : "\"" + nearest + "\"?"};
}

}  // namespace canyon::inertial
