// Rows as lines of a file, and what they come to.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "corpus/run.h"

namespace hextwist::corpus {

struct FileRow {
  Input input;
  Row row;
};

/// One line each, columns divided by tabs.
std::string header_line();
std::string line(const FileRow& of, unsigned seed);

/// Counts of outcomes, quantiles of quality, reasons, and every broken row. Markdown.
void print_summary(std::ostream& out, const std::vector<FileRow>& rows);

}  // namespace hextwist::corpus
