[
  (dynamics)
  (guess)
  (jump)
  (phase)
  (link)
  (method)
  (sweep)
  (report)
  (expect)
  (piecewise)
  (switch)
] @fold
