#include "canyon/fusion/propagation/row_kernels.h"

#include "canyon/core/process/vector_clones.h"

namespace canyon::fusion {
CANYON_VECTOR_CLONES void add_integrals(const FeedTerm* terms, int count, const double* carried, double dt_s,
                                        const double* __restrict errors, int stride, double* __restrict integrals,
                                        int width) {
  double rates[6 * kMostStates];
  bool fed[6] = {};
  for (int n = 0; n < count; ++n) {
    const double rate = terms[n].rate;
    const double* __restrict from = errors + terms[n].state * stride;
    double* __restrict to = rates + terms[n].axis * width;
    // The first term of an axis needs no zeros to be added to.
    if (fed[terms[n].axis]) {
      for (int j = 0; j < width; ++j) to[j] += rate * from[j];
    } else {
      for (int j = 0; j < width; ++j) to[j] = rate * from[j];
      fed[terms[n].axis] = true;
    }
  }
  const double first = carried[0], second = carried[1];
  const double rest_a = carried[1] - 0.5 * dt_s * carried[0], rest_g = carried[2] - 0.5 * dt_s * carried[1];
  const int triad = 3 * width;
  for (int axis = 0; axis < 3; ++axis) {
    double* __restrict to = integrals + axis * width;
    if (fed[axis]) {
      const double* __restrict gyro = rates + axis * width;
      for (int j = 0; j < width; ++j) {
        to[j] += first * gyro[j];
        to[triad + j] += second * gyro[j];
        to[2 * triad + j] += rest_g * gyro[j];
      }
    }
    if (fed[3 + axis]) {
      const double* __restrict accel = rates + (3 + axis) * width;
      for (int j = 0; j < width; ++j) {
        to[3 * triad + j] += first * accel[j];
        to[4 * triad + j] += rest_a * accel[j];
      }
    }
  }
}

CANYON_VECTOR_CLONES void move_rows(const StepCoefficients& step, const double* __restrict before, int stride,
                                    const double* __restrict integrals, double* __restrict after, int width) {
  const StepCoefficients s = step;
  const double half = 0.5 * s.dt_s;
  const double *t0 = before, *t1 = t0 + stride, *t2 = t1 + stride, *p = t2 + stride, *v0 = p + 3 * stride,
               *v1 = v0 + stride, *v2 = v1 + stride;
  const double* z = integrals;
  for (int i = 0; i < 3; ++i) {
    const double *a = s.theta_theta + 3 * i, *b = s.theta_gyro + 3 * i;
    double* __restrict out = after + i * width;
    for (int j = 0; j < width; ++j)
      out[j] = a[0] * t0[j] + a[1] * t1[j] + a[2] * t2[j] + b[0] * z[j] + b[1] * z[width + j] + b[2] * z[2 * width + j];
  }
  const double *p1 = p + stride, *p2 = p1 + stride;
  const double *g2 = z + 3 * width, *g3 = z + 6 * width, *a1 = z + 9 * width, *a2 = z + 12 * width;
  for (int i = 0; i < 3; ++i) {
    const double *vt = s.v_theta + 3 * i, *vp = s.v_p + 3 * i, *vv = s.v_v + 3 * i, *va = s.v_accel + 3 * i,
                 *vg = s.v_gyro + 3 * i;
    const double *p_i = p + i * stride, *v_i = v0 + i * stride;
    double* __restrict out_v = after + (6 + i) * width, * __restrict out_p = after + (3 + i) * width;
    for (int j = 0; j < width; ++j) {
      const double next = vt[0] * t0[j] + vt[1] * t1[j] + vt[2] * t2[j] + vp[0] * p[j] + vp[1] * p1[j] + vp[2] * p2[j] +
                          vv[0] * v0[j] + vv[1] * v1[j] + vv[2] * v2[j] + va[0] * a1[j] + va[1] * a1[width + j] +
                          va[2] * a1[2 * width + j] + vg[0] * g2[j] + vg[1] * g2[width + j] + vg[2] * g2[2 * width + j];
      out_v[j] = next;
      out_p[j] = p_i[j] + half * (v_i[j] + next) + va[0] * a2[j] + va[1] * a2[width + j] + va[2] * a2[2 * width + j] +
                 vg[0] * g3[j] + vg[1] * g3[width + j] + vg[2] * g3[2 * width + j];
    }
  }
}

CANYON_VECTOR_CLONES void add_products(double* rows, int count, int width, const double* __restrict left,
                                       const double* __restrict right) {
  const double *r0 = right, *r1 = r0 + width, *r2 = r1 + width;
  for (int i = 0; i < count; ++i) {
    double* __restrict row = rows + i * width;
    const double a = left[3 * i], b = left[3 * i + 1], c = left[3 * i + 2];
    for (int j = 0; j < width; ++j) row[j] += a * r0[j] + b * r1[j] + c * r2[j];
  }
}

CANYON_VECTOR_CLONES void scale_both(double* rows, int stride, int count, const double* __restrict factor) {
  for (int i = 0; i < count; ++i) {
    double* __restrict row = rows + i * stride;
    const double left = factor[i];
    for (int j = 0; j < count; ++j) row[j] *= left * factor[j];
  }
}

}  // namespace canyon::fusion
