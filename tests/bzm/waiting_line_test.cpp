// Kind of fault: silence while a check takes long. The line that says what is done.
#include <boltzmann/bzm/waiting_line.hpp>

#include <gtest/gtest.h>

namespace boltzmann::waiting_line_test {

using namespace std::chrono_literals;

TEST(WaitingLine, TellsEachStageOnceAfterAWhile) {
  testing::internal::CaptureStderr();
  {
    bzm::WaitingLine waiting(true, 20ms);
    waiting.doing("placing particles");
    std::this_thread::sleep_for(200ms);
    waiting.doing("calculating");
    std::this_thread::sleep_for(1200ms);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "placing particles\ncalculating\n");
}

TEST(WaitingLine, SaysNothingOfWhatIsQuickOrQuiet) {
  testing::internal::CaptureStderr();
  {
    bzm::WaitingLine quick(true), quiet(false, 1ms);
    quick.doing("a");
    quiet.doing("b");
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace boltzmann::waiting_line_test
