// make_hdf5 RAW OUT NX NY NZ: a file of bytes, x fastest, as dataset /scan of an HDF5 file, in packed pieces, with
// voxels of 2 x 3 x 4 micrometres; beside it a dataset /more, to be named if it is meant.
#include <hdf5.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <vector>

namespace {

void add(hid_t file, const char* name, const std::vector<char>& values, const std::array<hsize_t, 3>& size) {
  const hid_t space = H5Screate_simple(3, size.data(), nullptr), pieces = H5Pcreate(H5P_DATASET_CREATE);
  const std::array<hsize_t, 3> piece = {16, 32, 32};
  H5Pset_chunk(pieces, 3, piece.data());
  H5Pset_deflate(pieces, 1);
  const hid_t data = H5Dcreate2(file, name, H5T_STD_U8LE, space, H5P_DEFAULT, pieces, H5P_DEFAULT);
  H5Dwrite(data, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  const hsize_t three = 3;
  const hid_t triple = H5Screate_simple(1, &three, nullptr);
  const hid_t sides = H5Acreate2(data, "element_size_um", H5T_IEEE_F64LE, triple, H5P_DEFAULT, H5P_DEFAULT);
  const std::array<double, 3> zyx = {4, 3, 2};
  H5Awrite(sides, H5T_NATIVE_DOUBLE, zyx.data());
  H5Aclose(sides);
  H5Sclose(triple);
  H5Dclose(data);
  H5Pclose(pieces);
  H5Sclose(space);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  std::array<hsize_t, 3> size{};  // of z, y, x
  for (std::size_t i = 0; i < 3; ++i) size[i] = std::strtoull(argv[5 - i], nullptr, 10);
  std::vector<char> values(size[0] * size[1] * size[2]);
  std::ifstream(argv[1], std::ios::binary).read(values.data(), static_cast<std::streamsize>(values.size()));
  const hid_t file = H5Fcreate(argv[2], H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file < 0) return 2;
  add(file, "scan", values, size);
  add(file, "more", std::vector<char>(values.size()), size);
  return H5Fclose(file) < 0 ? 2 : 0;
}
