// What is kept of a command: the rows of its record, where indices become the ids that users know, and the journal.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hextwist/base/text.h"
#include "hextwist/mesh/entity.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/patch/verify.h"
#include "hextwist/session/session.h"

namespace hextwist {

/// A broken file can have a violation per hex; nobody reads more rows than this, and the count says the rest.
inline constexpr std::size_t max_violation_rows = 1000;

QualityRow quality_row(const Mesh& mesh, const Summary& summary);
MeshState mesh_state(const Mesh& mesh, const Measured& measured);
SizesRow sizes_row(const Mesh& mesh, const SizeReport& sizes);
/// Makes these the violations of the record (warnings apart) and returns a line on those that are not warnings, "" if
/// none.
std::string record_violations(CommandRecord& record, const Mesh& mesh, const std::vector<Violation>& violations);

/// ", nodes at most 0.001 off the CAD", or off the skin of the mesh; nothing where no node is on it.
std::string off_text(const char* separator, const OffModel& off, bool has_cad);

/// The journal that commands are written to.
struct Recording {
  std::filesystem::path file;
  std::ofstream stream;
  std::int64_t n_commands = 0;

  /// False: it can't be written.
  bool write(const std::string& command);
};

inline std::string counted(std::int64_t n, EntityKind kind) {
  return counted(n, name(kind), plural(kind));
}

}  // namespace hextwist
