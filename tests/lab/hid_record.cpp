#include "tests/lab/hid_record.h"

#include <cstddef>
#include <fstream>
#include <ios>
#include <iterator>
#include <sstream>
#include <string>

namespace fude::lab {

HidRecord read_hid_record(const std::filesystem::path& file) {
  HidRecord record;
  std::ifstream in(file);
  int interface = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind.starts_with("D:")) interface = std::stoi(kind.size() > 2 ? kind.substr(2) : line.substr(2));
    if (interface != 0 || (kind != "R:" && kind != "E:")) continue;
    double time = 0;
    std::size_t size = 0;
    if (kind == "E:") words >> time;
    words >> std::dec >> size >> std::hex;
    Bytes bytes;
    for (unsigned byte = 0; bytes.size() < size && words >> byte;)
      bytes.push_back(static_cast<std::byte>(byte));
    if (kind == "R:")
      record.descriptor = bytes;
    else
      record.reports.push_back(bytes);
  }
  return record;
}

Bytes read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

}  // namespace fude::lab
