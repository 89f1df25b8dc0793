#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"

namespace canyon::fusion {

/// Normal numbers of unit variance, one after another, and what is made of them.
class DrawnNumbers {
 public:
  explicit DrawnNumbers(std::uint64_t seed) : draws_(seed, "stress.graphs") {}
  double next() { return draws_.normal(0, n_++); }
  Eigen::Vector3d three() {
    Eigen::Vector3d out;
    for (int i = 0; i < 3; ++i) out[i] = next();
    return out;
  }
  Vector6d xi(double turn_rad, double move_m) {
    Vector6d out;
    for (int i = 0; i < 6; ++i) out[i] = (i < 3 ? turn_rad : move_m) * next();
    return out;
  }
  Eigen::MatrixXd positive(Eigen::Index n, double least) {
    Eigen::MatrixXd A(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) A(i, j) = next();
    return A * A.transpose() + least * Eigen::MatrixXd::Identity(n, n);
  }
  Eigen::MatrixXd any(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd A(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index j = 0; j < columns; ++j) A(i, j) = next();
    return A;
  }

 private:
  RandomStream draws_;
  std::uint64_t n_ = 0;
};

}  // namespace canyon::fusion
