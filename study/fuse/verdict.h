#pragma once

#include <string>
#include <vector>

#include "canyon/study/fuse/run.h"

namespace canyon::study {

/// What the consistency of a run says, a line each: of the errors against the reference, and of the innovations.
/// `score`: of the run's errors.
std::vector<std::string> fuse_verdict(const Fused& run, const FuseScore& score);

}  // namespace canyon::study
