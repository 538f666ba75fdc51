;;; Fathom in Emacs itself, without a window (scripts/editors.sh): emacs --batch -l emacs.el
;;; with FATHOM_ROOT, FATHOM_PROGRAM and, to write into, an empty folder FATHOM_WORK.  -*- lexical-binding: t -*-
(package-initialize)
(add-to-list 'load-path (concat (getenv "FATHOM_ROOT") "/editors/emacs"))
(require 'eglot)
(require 'fathom-mode)
(setq fathom-program (getenv "FATHOM_PROGRAM") eglot-sync-connect 20 eglot-autoshutdown t)

(defun demand (holds what)
  (unless holds
    (message "emacs: %s" what)
    (kill-emacs 1)))

(defun await (what test)
  "Run timers and processes until TEST holds, twenty seconds at most."
  (let ((end (time-add nil 20)))
    (while (and (not (funcall test)) (time-less-p nil end)) (accept-process-output nil 0.1))
    (demand (funcall test) what)))

(defun ask (method &rest params)
  (eglot--signal-textDocument/didChange)
  (jsonrpc-request (eglot--current-server-or-lose) method
                   (append params (eglot--TextDocumentPositionParams))))

(let ((file (concat (getenv "FATHOM_WORK") "/a.sdf")))
  (with-temp-file file (insert "let r = 1\nbox([r, 3, r]).twist(0.4, axis: Y)\ntorus(2, 0.1)\n"))
  (find-file file)
  (demand (eq major-mode 'fathom-mode) "the mode is fathom-mode")
  (apply #'eglot (eglot--guess-contact))
  (demand (eglot-current-server) "the server runs")

  (goto-char (point-min))
  (search-forward "twi")
  (let ((said (plist-get (plist-get (ask :textDocument/hover) :contents) :value)))
    (demand (string-match-p "`twist` here: bound 1.1" said) "hover says the bound"))

  (goto-char (point-max))
  (insert "torus(2, 0.1).")
  (let ((labels (mapcar (lambda (item) (plist-get item :label)) (ask :textDocument/completion))))
    (demand (member "translate" labels) "completion after a dot offers methods")
    (demand (not (member "r" labels)) "… and no values"))
  (insert "shpere(1)")
  (eglot--signal-textDocument/didChange)
  (flymake-mode 1)
  (await "an error is shown" (lambda () (flymake-start) (flymake-diagnostics)))
  (demand (= 4 (line-number-at-pos (flymake-diagnostic-beg (car (flymake-diagnostics)))))
          "the error is in line 4")

  (delete-region (line-beginning-position) (point))
  (goto-char (point-min))
  (search-forward "let ")
  (eglot--apply-workspace-edit (ask :textDocument/rename :newName "width") nil)
  (demand (string-match-p (regexp-quote "box([width, 3, width])") (buffer-string))
          "the name is another")
  (message "emacs: hover, completion, errors and rename are right"))
(kill-emacs 0)
