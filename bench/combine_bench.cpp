// combine/N/tT: the union of the bunny and the bunny moved as move/N/tT moves it; combine-and, combine-minus and
// combine-xor: the other operations on the same pair.
#include "blackleaf/set_operations.h"
#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {

void add_combine() {
  using Operation = Octree (*)(const Octree&, const Octree&, const Work&);
  const std::initializer_list<std::pair<const char*, Operation>> operations = {{"combine", unite},
                                                                               {"combine-and", intersect},
                                                                               {"combine-minus", subtract},
                                                                               {"combine-xor", symmetric_difference}};
  for (const auto& [name, operation] : operations)
    for (const int depth : {8, 9, 10})
      for (const int threads : {1, 2})
        contender(std::string(name) + "/" + side_name(depth) + "/t" + std::to_string(threads), "ours",
                  [=](benchmark::State& state) {
                    const Octree &a = bunny(depth), &b = moved_bunny(depth);
                    for (auto _ : state) benchmark::DoNotOptimize(operation(a, b, {threads, {}}));
                  });
}

}  // namespace blackleaf::bench
