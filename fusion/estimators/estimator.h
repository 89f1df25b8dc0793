#pragma once

#include <memory>

#include "canyon/core/model_choice.h"
#include "canyon/fusion/copied.h"
#include "canyon/fusion/error_state.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/propagation/error_propagation.h"

namespace canyon::fusion {

/// K = P H' S^-1.
using Gain = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMostStates, Measurement::kMost>;

/// K residual: an error of all states, padded; it needs no memory of its own.
using ErrorVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostStates, 1>;

/// The form in which a filter keeps the covariance of its errors, and what of an error a correction takes to be kept.
/// One-level interface; the models are in the table below, each in its own file.
class Estimator {
 public:
  virtual ~Estimator() = default;
  virtual std::unique_ptr<Estimator> clone() const = 0;

  /// Takes P, symmetric and not negative.
  virtual void set(const ErrorMatrix& P) = 0;
  /// As it stands, symmetric to the bit.
  virtual const ErrorMatrix& covariance() = 0;
  virtual void propagate(ErrorPropagation& step) = 0;
  /// By a measurement with its gain, and H P.
  virtual void correct(const Measurement& m, const Gain& K, const Measurement::Rows& HP) = 0;
  /// Adds the estimated error to the state; the errors are then counted from the corrected one.
  virtual void inject(ErrorState& state, const ErrorVector& error) = 0;
};

using MakeEstimator = std::unique_ptr<Estimator>();
ModelTable<MakeEstimator> estimators();

/// Makers of the rows of the table in estimators/estimators.cpp.
std::unique_ptr<Estimator> make_joseph();
std::unique_ptr<Estimator> make_ud();
std::unique_ptr<Estimator> make_invariant();

}  // namespace canyon::fusion
