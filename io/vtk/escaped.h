// Text in XML.
#pragma once

#include <string>

namespace hextwist::io {

/// Text with & < > ", tabs and line ends as it may stand in an attribute; other control characters, which XML hasn't,
/// as blanks.
std::string escaped(const std::string& text);

}  // namespace hextwist::io
