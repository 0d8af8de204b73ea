;;; test.el --- A broken model in a real Emacs  -*- lexical-binding: t -*-

;; Run by editors/test, in the folder of the repository, with `fdcc' in PATH; eglot is asked for where it is installed.

;;; Code:

(package-initialize)
(require 'eglot)
(load (expand-file-name "editors/emacs/fdc-mode.el"))
(setq eglot-sync-connect 10)

(defun check (truth what seen)
  (unless truth
    (message "FAILED: %s: %S" what seen)
    (kill-emacs 1))
  (message "ok: %s" what))

(with-temp-file "target/editors/broken-emacs.fdc"
  (insert-file-contents "models/racecar.fdc")
  (search-forward "muN*Sgn")
  (replace-match "muM*Sgn"))
(find-file "target/editors/broken-emacs.fdc")
(check (eq major-mode 'fdc-mode) "a model is recognised" major-mode)

(font-lock-ensure)
(goto-char (point-min))
(search-forward "state th")
(check (eq (get-text-property (match-beginning 0) 'face) 'font-lock-keyword-face) "words have colours" (point))

(search-forward "vel' in")
(insert " ")
(let ((indentation (current-indentation)))
  (indent-line-to 0)
  (indent-for-tab-command)
  (check (= (current-indentation) indentation 2) "a line between braces is further in" (current-indentation)))
(undo-boundary)
(revert-buffer t t)

(call-interactively #'eglot)
(with-timeout (20 (check nil "mistakes are shown" (flymake-diagnostics)))
  (while (not (seq-some (lambda (it) (string-match-p "muM" (flymake-diagnostic-text it))) (flymake-diagnostics)))
    (accept-process-output nil 0.1)))
(message "ok: mistakes are shown")
(kill-emacs 0)

;;; test.el ends here
