; Both names of each: the first is Neovim's, the second Helix's.

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
  (group)
  (call)
] @indent.begin @indent

[ "}" ")" ] @indent.branch @outdent
