#pragma once

#include "canyon/core/result.h"

namespace canyon::apps {

/// To be called first. Of the standard streams those that are closed lead nowhere from now on (else the next file that
/// is opened would be taken for one), and neither a pipe that nobody reads any more nor a limit on the size of files
/// ends the process before it has cleaned up: both become errors of writing.
void prepare_standard_streams();

/// What was printed has arrived: exit status 1 if not (a full disk). If nobody reads the pipe any more (`| head -1`)
/// the process ends here, silently by SIGPIPE, as others do.
Status finish_standard_output();

}  // namespace canyon::apps
