// NRRD files written by hand, so that the reader is not tested against our own writer alone.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "file/temporary_folder.h"

namespace blackleaf::test {

template <class T>
std::string raw_bytes(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::string nrrd_header(const std::string& type, const std::string& sizes, int dimension,
                               const std::string& more =
                                   "space: left-posterior-superior\n"
                                   "space directions: (1,0,0) (0,1,0) (0,0,1)\n"
                                   "space origin: (0,0,0)\n",
                               const std::string& encoding = "raw") {
  return "NRRD0004\ntype: " + type + "\ndimension: " + std::to_string(dimension) + "\nsizes: " + sizes + "\n" + more +
         "encoding: " + encoding + "\nendian: little\n";
}

template <class T>
void write_nrrd(const std::filesystem::path& path, const std::string& type, const std::string& sizes,
                const std::vector<T>& values) {
  write_file(path, nrrd_header(type, sizes, 3) + "\n" + raw_bytes(values));
}

}  // namespace blackleaf::test
