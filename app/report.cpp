#include "report.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "hextwist/base/replacement.h"
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
  Replacement replacement(file, true);
  errno = 0;
  std::ofstream stream(replacement.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) replacement.fail(std::string("the report can't be written: ") + std::strerror(errno ? errno : EIO));
  replacement.commit();
}

}  // namespace hextwist::app
