#pragma once

#include <functional>
#include <string>

#include "canyon/core/result.h"

namespace canyon::scene {

/// Bytes that `work` makes in a process of its own: for libraries that a damaged file can bring down. Whatever happens
/// there, by a signal or by std::abort, is an error of `file` in one line; what the library prints is not shown. `work`
/// may return an error, of which file, line, what and expected arrive; an exception that leaves it is one, too. It must
/// not start threads or wait for those of the caller, of which there are none in the new process. Throws Cancelled, and
/// ends that process, when the user asked to stop.
Result<std::string> in_a_process_of_its_own(const std::string& file, const std::function<Result<std::string>()>& work);

}  // namespace canyon::scene
