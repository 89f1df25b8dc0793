#pragma once

#include <string>

namespace canyon {

/// A part of Canyon that stands on a large library, such as PCL, and is opened when it is first used, so that what does
/// not use it does not wait for the library. Each part is a table of functions, an object of C linkage:
///
///     struct PclPart { std::unique_ptr<Registration> (*make_gicp)(const RegistrationConfig&); };
///     extern "C" [[gnu::weak]] const PclPart canyon_pcl_part;              // in the part's header
///     library_part("pcl", &canyon_pcl_part).make_gicp(config);             // where it is used
///
/// A program that links the part itself (the target canyon_pcl) has the table at hand. Otherwise the table's address is
/// null, and the part is the shared object libcanyon_pcl.so: in the folder that the environment variable
/// CANYON_PART_DIR names, else where it was installed as seen from the program's own folder (an installation may be
/// moved as a whole), else in ../lib/canyon beside that folder, where the build leaves it. It must be of the same build
/// as the program: nothing but the name of the table is checked. Throws std::runtime_error, which names the file and
/// why it cannot be opened. Safe from any thread; never closed.
const void* open_library_part(const std::string& name);

template <class Part>
const Part& library_part(const char* name, const Part* linked) {
  if (linked != nullptr) return *linked;
  static const Part* const opened = static_cast<const Part*>(open_library_part(name));
  return *opened;
}

}  // namespace canyon
