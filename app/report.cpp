#include "report.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "hextwist/session/record_json.h"

namespace hextwist::app {

void write_report(const std::filesystem::path& file, std::span<const CommandRecord> records, const std::string& error) {
  Json report;
  report["program"] = "hextwist";
  report["version"] = HEXTWIST_VERSION;
  report["ok"] = error.empty();
  report["error"] = error.empty() ? Json() : Json(error);
  report["commands"] = Json::array();
  for (const CommandRecord& record : records) report["commands"].push_back(record_json(record));
  // What users typed need not be UTF-8.
  const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  // A device or pipe is written to as it is.
  std::error_code ignored;
  const bool special = std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
  std::filesystem::path temporary = file;
  if (!special) temporary += ".tmp" + std::to_string(getpid());
  errno = 0;
  std::ofstream stream(temporary, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code failed;
  if (stream && !special) std::filesystem::rename(temporary, file, failed);
  if (stream && !failed) return;
  const std::string reason = failed ? failed.message() : std::strerror(errno ? errno : EIO);
  if (!special) std::filesystem::remove(temporary, ignored);
  throw Error(file.string() + ": the report can't be written: " + reason);
}

}  // namespace hextwist::app
