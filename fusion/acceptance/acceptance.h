#pragma once

#include <memory>

#include "canyon/core/model_choice.h"
#include "canyon/core/time.h"
#include "canyon/fusion/measurements/measurement.h"

namespace canyon::fusion {

/// A place that something moving has been measured at, beside where the estimate has it; along E's axes.
struct PlaceBeside {
  /// Measured minus predicted, with what the states hold of the measurement's lasting error.
  Eigen::Vector3d off_m = Eigen::Vector3d::Zero();
  /// The same of the velocity that was measured with it; zero if none was.
  Eigen::Vector3d leaving_m_s = Eigen::Vector3d::Zero();
  bool velocity_measured = false;
  double speed_m_s = 0.0;  ///< of the estimate
  /// Of off_m, normalized by what is expected of it while nothing is known of the lasting error but its law;
  /// chi-square with three degrees of freedom.
  double nis = 0.0;
};

/// What a measurement would do: its residual, the covariance of its noise, and H P H', that of what was predicted.
struct Innovation {
  GpsTime t;
  const Measurement::Vector& residual;
  const Measurement::Square& R;
  const Measurement::Square& predicted;
  double nis = 0.0;  ///< normalized by R + predicted; chi-square with as many degrees of freedom as residual has
  const PlaceBeside* place = nullptr;  ///< of a place alone
};

/// What is made of it.
struct Decision {
  bool accepted = true;
  double noise_scale = 1.0;  ///< R is taken times this
  double loosening = 1.0;    ///< the filter has lost its way: what it measures is so many times less sure than expected
  /// Above 0, what it has been taught is in doubt too: its blocks, its attitude, its velocity by this 1-sigma per axis.
  double loosening_m_s = 0.0;
};

/// Decides on the measurements of one model, in turn. One-level interface; the models are in the table below, each in
/// its own file with its own parameters.
class Acceptance {
 public:
  virtual ~Acceptance() = default;
  virtual std::unique_ptr<Acceptance> clone() const = 0;
  /// The filter begins anew.
  virtual void start() {}
  virtual Decision decide(const Innovation& innovation) = 0;
  /// Whether it takes every measurement as it is, so that estimates are linear in what is measured.
  virtual bool takes_all() const { return false; }
  /// A correction has moved the estimated place by so much along E's axes, m: one by this model's measurements, or by
  /// others.
  virtual void moved(const Eigen::Vector3d& /*by_m*/, bool /*by_this*/) {}
};

using MakeAcceptance = std::unique_ptr<Acceptance>(const ModelParameters& own);
ModelTable<MakeAcceptance> acceptance_models();

/// Makers of the rows of the table in acceptance/acceptance_models.cpp, and their parameters, each in the file of its
/// model.
std::unique_ptr<Acceptance> make_gate(const ModelParameters& own);
void gate_parameters(ModelParameters& section);
std::unique_ptr<Acceptance> make_huber(const ModelParameters& own);
void huber_parameters(ModelParameters& section);
std::unique_ptr<Acceptance> make_student_t(const ModelParameters& own);
void student_t_parameters(ModelParameters& section);
std::unique_ptr<Acceptance> make_innovation_adaptive(const ModelParameters& own);
void innovation_adaptive_parameters(ModelParameters& section);
std::unique_ptr<Acceptance> make_fuzzy_adaptive(const ModelParameters& own);
void fuzzy_adaptive_parameters(ModelParameters& section);

}  // namespace canyon::fusion
