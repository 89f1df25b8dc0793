#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {
namespace {

/// Believes the guess: no work, no statement about its error (the covariance stays NaN).
class NoRegistration final : public Registration {
 public:
  std::shared_ptr<const PreparedCloud> prepare(std::span<const Eigen::Vector3f>) const override {
    return std::make_shared<PreparedCloud>();
  }
  RegistrationResult align(const PreparedCloud&, std::span<const Placed>, const Pose& guess) const override {
    RegistrationResult result;
    result.status = RegistrationStatus::kConverged;
    result.X_TS = guess;
    return result;
  }
};

}  // namespace

std::unique_ptr<Registration> make_no_registration(const ModelParameters&) {
  return std::make_unique<NoRegistration>();
}

}  // namespace canyon::lidar
