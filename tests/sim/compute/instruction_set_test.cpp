#include "sim/compute/instruction_set.h"

#include <gtest/gtest.h>

namespace fude {
namespace {

TEST(InstructionSet, NamesGoBothWays) {
  for (InstructionSet set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512})
    EXPECT_EQ(instruction_set_named(name_of(set)), set);
  EXPECT_FALSE(instruction_set_named("neon"));
}

TEST(InstructionSet, EveryProcessorOfThisArchitectureHasTheFirst) {
  EXPECT_TRUE(processor_has(InstructionSet::sse2));
  EXPECT_EQ(choose_instruction_set(InstructionSet::sse2).value(), InstructionSet::sse2);
  EXPECT_TRUE(processor_has(choose_instruction_set(std::nullopt).value()));
}

}  // namespace
}  // namespace fude
