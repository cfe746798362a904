#!/usr/bin/env python3
"""Writes docs/zh_TW/ and web/words_zh_tw.js, in traditional Chinese, from simplified. Needs Debian's package opencc.

OpenCC chooses words that are used in Taiwan (s2twp). TERMS corrects its choices, in this order.
"""
import hashlib
import os
import subprocess

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
FILES = {'web/words_zh.js': 'web/words_zh_tw.js', **{
    f'docs/zh/{name}': f'docs/zh_TW/{name}' for name in os.listdir(os.path.join(ROOT, 'docs', 'zh'))}}
TERMS = dict(pair.split('>') for pair in (
    '話題>主題 引數>參數 功能包>套件 軟體包>套件 軟體源>套件庫 倉庫>儲存庫 克隆>複製 指令碼>腳本 回撥>回呼 '
    '釋出>發布 發佈>發布 傳送>發送 異常>例外 丟擲>拋出 程式碼塊>程式碼區塊 註釋>註解 全域性>全域 '
    '名稱空間>命名空間 標定>校正 超時>逾時 實時>即時 運行>執行 教程>教學 終端>終端機 複選框>核取方塊 '
    '膝上型電腦>筆記型電腦 影象>影像 卷尺>捲尺 電機>馬達 主目錄>家目錄 臺>台 釐米>公分 毫米>公釐 '
    '米>公尺 許可權>權限 列印出>印出 打印出>印出 列印>印出 地址>位址 身份>身分 配置>設定 應答>回應 生成>產生 隨機數>亂數 '
    '捕獲>捕捉 埠>連接埠 串列連接埠>序列埠 啟動檔案>啟動檔 程式庫>函式庫 故障排除>疑難排解 復位>重設 重置>重設 '
    '返回速度>回傳速度 返回的整數>回傳的整數 類>類別 種類別>種類 類別型>類型 類別似>類似 “>「 ”>」').split())


def digest(text):
    """A short hash that does not depend on line breaks."""
    return hashlib.sha1(' '.join(text.split()).encode()).hexdigest()[:8]


def marked(simplified, traditional):
    """The text, with a last line that changes with the simplified text, with this text, and with TERMS."""
    mark = f'script/traditional.py: {digest(simplified + traditional + str(TERMS))}'
    return f'{traditional}\n' + (f'// {mark}\n' if traditional.startswith('//') else f'<!-- {mark} -->\n')


def convert(simplified):
    """The text in traditional Chinese."""
    text = subprocess.run(['opencc', '-c', 's2twp'], input=simplified.encode(), stdout=subprocess.PIPE,
                          check=True).stdout.decode()
    for chosen, usual in TERMS.items():
        text = text.replace(chosen, usual)
    return text


if __name__ == '__main__':
    for source, target in FILES.items():
        with open(os.path.join(ROOT, source), encoding='utf-8') as file:
            text = file.read()
        with open(os.path.join(ROOT, target), 'w', encoding='utf-8') as file:
            file.write(marked(text, convert(text)))
