;;; fdc-mode.el --- Models of optimal control problems with friction  -*- lexical-binding: t -*-

;; Colours and indentation of `.fdc' models, and the language server by eglot.
;; The lists below lines that say `words:' are written by tests/tests/editors.rs.

;;; Code:

(defconst fdc-items
  '(
    ;; words: items
"model" "param" "const" "let" "fn" "data" "free" "time" "state" "control" "surface" "dynamics" "metric" "jump" "start" "end" "path" "minimize" "maximize" "guess" "phase" "link" "method" "sweep" "report" "expect"
    ))

(defconst fdc-keywords
  '(
    ;; words: keywords
"in" "match" "piecewise" "otherwise" "below" "above" "within"
    ))

(defconst fdc-functions
  '(
    ;; words: functions
"sqrt" "exp" "log" "sin" "cos" "tan" "asin" "acos" "atan" "atan2" "sinh" "cosh" "tanh" "abs" "min" "max" "dot" "norm" "normsq" "cross" "Sgn" "Dir" "selected" "integral" "sum" "interpolate" "blend" "sliding" "sensitivity"
    ))

(defvar fdc-font-lock
  `((,(regexp-opt (append fdc-items fdc-keywords) 'symbols) . font-lock-keyword-face)
    (,(concat (regexp-opt fdc-functions 'symbols) "(") 1 font-lock-builtin-face)
    ("\\[[^],\n]*[[:alpha:]°%][^],\n]*\\]" . font-lock-type-face)))

(defvar fdc-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?# "<" table)
    (modify-syntax-entry ?\n ">" table)
    (modify-syntax-entry ?_ "_" table)
    (modify-syntax-entry ?' "." table)
    table))

(defun fdc-indent-line ()
  "Indent by two for every brace that is open."
  (let* ((depth (save-excursion (beginning-of-line) (car (syntax-ppss))))
         (closes (save-excursion (back-to-indentation) (looking-at "}"))))
    (save-excursion (indent-line-to (* 2 (max 0 (- depth (if closes 1 0))))))
    (when (< (current-column) (current-indentation)) (back-to-indentation))))

;;;###autoload
(define-derived-mode fdc-mode prog-mode "fdc"
  "Major mode for models of optimal control problems."
  (setq-local comment-start "# "
              comment-start-skip "#+!?[ \t]*"
              indent-tabs-mode nil
              indent-line-function #'fdc-indent-line
              font-lock-defaults '(fdc-font-lock)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.fdc\\'" . fdc-mode))

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(fdc-mode "fdcc" "lsp")))

(when (fboundp 'eglot-ensure)
  (add-hook 'fdc-mode-hook #'eglot-ensure))

(provide 'fdc-mode)

;;; fdc-mode.el ends here
