;;; fathom-words.el --- the words of Fathom  -*- lexical-binding: t -*-
;; Written by editors/make.py from `fathom doc --json`; do not change it here.

;;; Code:
(defconst fathom-control '(@STRINGS(control)@))
(defconst fathom-declaring '(@STRINGS(declaring)@ "and" "not" "or"))
(defconst fathom-truths '(@STRINGS(truths)@))
(defconst fathom-types '(@STRINGS(types)@))
(defconst fathom-units '(@STRINGS(units)@))
(defconst fathom-constants
  '(@ELISP(constants)@))
(defconst fathom-colors
  '(@ELISP(colors)@))
(defconst fathom-functions
  '(@ELISP(functions)@))

(provide 'fathom-words)
;;; fathom-words.el ends here
