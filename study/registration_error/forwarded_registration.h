#pragma once

#include <memory>
#include <span>
#include <utility>

#include "canyon/lidar/registration/registration.h"

namespace canyon::study {

/// A method that aligns as another one does; where its clouds come from, who derives from it says.
class ForwardedRegistration : public lidar::Registration {
 public:
  lidar::RegistrationResult align(const lidar::PreparedCloud& source, std::span<const Placed> targets,
                                  const Pose& guess) const override {
    return method_->align(source, targets, guess);
  }
  lidar::RegistrationResult align_with_prior(const lidar::PreparedCloud& source, std::span<const Placed> targets,
                                             const lidar::PosePrior& prior) const override {
    return method_->align_with_prior(source, targets, prior);
  }

 protected:
  explicit ForwardedRegistration(std::unique_ptr<lidar::Registration> method) : method_(std::move(method)) {}
  const lidar::Registration& method() const { return *method_; }

 private:
  std::unique_ptr<lidar::Registration> method_;
};

}  // namespace canyon::study
