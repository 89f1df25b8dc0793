#include "canyon/apps/line/command_line.h"

/// Of the source that was built, written by cmake/commit.cmake; empty if it is not known.
extern const char* const canyon_commit;

int main(int argc, char** argv) {
  return canyon::apps::run_command_line(argc, argv, canyon_commit);
}
