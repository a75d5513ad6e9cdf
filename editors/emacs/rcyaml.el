;;; rcyaml.el --- rcyaml with eglot -*- lexical-binding: t; -*-

;; Emacs 29 has eglot; earlier ones get it from ELPA (Debian: apt install elpa-eglot elpa-yaml-mode).
;; Load this file from the init file: (load "/path/to/rcyaml.el")

;;; Code:

(defvar rcyaml-command '("rcyaml" "lsp")
  "The command of the language server, such as (\"rcyaml\" \"lsp\" \"-I\" \"/path\").")

(defun rcyaml--contact (&rest _)
  "The command of the server, for eglot."
  (unless (executable-find (car rcyaml-command))
    (user-error "%s is not found: pip install 'rcyaml[lsp]'" (car rcyaml-command)))
  rcyaml-command)

(defun rcyaml--project (folder)
  "The workspace of FOLDER: the nearest folder with an rcyaml.yaml, as a project."
  (when-let ((root (locate-dominating-file folder "rcyaml.yaml")))
    (cons 'transient root)))

(defun rcyaml-ensure ()
  "Start the server in the documents of rcyaml."
  (when (and buffer-file-name
             (string-match-p "\\(?:rcyaml\\|[./][icpd]dsl\\|[./]config\\)\\.yaml\\'" buffer-file-name))
    (eglot-ensure)))

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '((yaml-mode yaml-ts-mode) . rcyaml--contact)))
(with-eval-after-load 'project
  (add-hook 'project-find-functions #'rcyaml--project))
(autoload 'eglot-ensure "eglot" nil t)
(add-hook 'yaml-mode-hook #'rcyaml-ensure)
(add-hook 'yaml-ts-mode-hook #'rcyaml-ensure)

(provide 'rcyaml)
;;; rcyaml.el ends here
