#pragma once

#include <string>

namespace canyon::apps {

/// How the program was called, for the records that results keep of themselves.
struct Invocation {
  std::string command_line;  ///< "canyon run my.toml --seed 7", quoted for a shell where it must be
  std::string commit;        ///< of the source, "-modified" after it if there was more; empty: not known
};

/// Of this process; set once by run_command_line().
const Invocation& invocation();
void set_invocation(int argc, char** argv, const char* commit);

}  // namespace canyon::apps
