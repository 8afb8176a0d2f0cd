// Makes the errors that command_error.h describes.
#pragma once

#include <string>
#include <string_view>

#include "hextwist/command/command_error.h"
#include "hextwist/command/token.h"

namespace hextwist {

/// The error for one token of a statement, caret included.
CommandError error_at(const Statement& statement, const Token& token, const std::string& message);

/// The error for a command that could not be done although every word was right: one line.
CommandError error_in(const Statement& statement, const std::string& message);

/// Text from users inside a message: control characters and broken UTF-8 become '?', long text is cut.
std::string printable(std::string_view text, std::size_t max_bytes = 60);

}  // namespace hextwist
