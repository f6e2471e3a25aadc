#ifndef MESHGROW_CLI_ASKER_PROCESSOR_H
#define MESHGROW_CLI_ASKER_PROCESSOR_H

namespace meshgrow::cli {

/// Keeps this thread on the processor where the process that started this one runs. Who asks
/// through pipes and who answers take turns, so nothing is lost by sharing a processor, and a turn
/// takes a tenth of the time that it takes to wake another processor
/// (tests/benchmarks/serve_speed.py).
class AskerProcessor {
 public:
  AskerProcessor();

  /// To be called at each turn; now and then, looks where the asker is. Does nothing where the
  /// system does not tell, and never fails.
  void follow();

 private:
  int asker_ = 0;
  int processor_ = -1;
  unsigned turns_ = 0;
};

}  // namespace meshgrow::cli

#endif
